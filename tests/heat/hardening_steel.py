"""A steel of round numbers whose austenite becomes martensite below 300 degC, for decks of tests."""


def hardening_steel(name, austenite_et, martensite_et):
    """The text of the steel; hardening moduli of its phases [MPa]."""
    return f"""STEEL  {name}
SOURCE 'round numbers of a steel that hardens'
TEMPS  MS 300
MARTEN BETA 0.011
EXPAND TOTAL 20
TRIP   DESALOS
PHASE  ALL
   LAMBDA 30
   RHOC   4.5
   E      TABLE 20 205000  800 140000
   NU     0.3
PHASE  AUSTENITE
   ALPHA  22E-6
   SY     TABLE 20 220  800 50
   ET     {austenite_et}
PHASE  MARTENSITE
   ALPHA  12E-6
   DEPS   0.0105
   SY     1200
   ET     {martensite_et}
   KTP    8E-5
END
"""
