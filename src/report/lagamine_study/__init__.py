"""`lagastudy`: one deck over ladders of parameters, what accuracy costs in time."""
