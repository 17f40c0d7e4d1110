#!/usr/bin/env python3
"""What is made of --help and of the list of cards: manual pages, completion for bash, syntax colours. man and vim are asked where they are."""
import glob
import json
import os
import re
import shutil
import subprocess
import tempfile
import unittest

HERE = os.path.dirname(os.path.abspath(__file__))
SOURCE = os.path.abspath(os.environ.get("LAGAMINE_SOURCE") or os.path.dirname(os.path.dirname(HERE)))
BIN = os.path.abspath(os.environ.get("LAGAMINE_BIN") or os.path.join(SOURCE, "build", "bin"))
MADE = os.path.join(os.path.dirname(BIN), "share", "documents")
PROGRAMS = ("lagamine", "lagacycle", "remdata", "lagareport", "lagaimport", "lagastudy")
DECKS = sorted(glob.glob(os.path.join(SOURCE, "decks", "*", "*.lag")))


def call(*command, **more):
    """What a command prints; it must succeed."""
    done = subprocess.run(command, text=True, capture_output=True, stdin=subprocess.DEVNULL, check=False, timeout=120, **more)
    if done.returncode != 0:
        raise AssertionError(f"{' '.join(command)} ended with {done.returncode}: {done.stderr}")
    return done.stdout


def options_of(program):
    """Options that the help of a program speaks of."""
    return set(re.findall(r"(?<![\w-])--[a-z]+", call(os.path.join(BIN, program), "--help").replace("lagamine --resume", "")))


def cards():
    return call(os.path.join(BIN, "lagamine"), "--cards").split()


class Pages(unittest.TestCase):
    def test_every_option_has_its_line(self):
        for program in PROGRAMS:
            with open(os.path.join(MADE, "man", program + ".1"), encoding="utf-8") as file:
                page = file.read().replace("\\-", "-")
            for option in options_of(program):
                self.assertIn(option, page, program)
            for heading in (".SH NAME", ".SH SYNOPSIS", ".SH OPTIONS", ".SH EXIT STATUS", ".SH SEE ALSO"):
                self.assertIn(heading + "\n", page, program)
        self.assertIn(r"history.csv", page_of("lagacycle"))

    @unittest.skipUnless(shutil.which("man"), "no man here")
    def test_man_reads_them_without_a_warning(self):
        for path in sorted(glob.glob(os.path.join(MADE, "man", "laga*.1"))):
            done = subprocess.run(["man", "--warnings", "-P", "cat", "-l", path], text=True, capture_output=True, check=False,
                                  env=dict(os.environ, LC_ALL="C.UTF-8", MANWIDTH="80"))
            self.assertEqual((0, ""), (done.returncode, done.stderr), path)
            self.assertIn("EXIT STATUS", done.stdout)


def rows_of_nobody(text):
    """Rows of a README with three numbers or more that stand between no two equal marks, <!-- word -->: no command makes them anew."""
    rows, within = [], ""
    for part in re.split(r"(<!-- \w+ -->)", text):
        if part.startswith("<!-- "):
            within = "" if part == within else part
        elif not within:
            rows += [row for row in part.splitlines() if row.startswith("|") and sum(map(is_number, row.strip("|").split("|"))) >= 3]
    return rows


def is_number(cell):
    """A cell is a number, with an unit of % or without, or several of them."""
    return re.fullmatch(r"[-+−]?[0-9][0-9.eE%+−\- ]*", cell.strip()) is not None


class Tables(unittest.TestCase):
    def test_rows_without_a_command(self):
        self.assertTrue(is_number("-1318 1035") and is_number("+0.0004") and is_number("1e-4 %") and not is_number("6 x 9") and not is_number(""))
        row = "| can | 1 | 2. | -3e-4 |\n"
        self.assertEqual([row.strip()], rows_of_nobody(f"{row}<!-- a -->\n{row}<!-- a -->\n"))

    def test_numbers_of_decks_are_made_by_commands(self):
        """What no command makes anew drifts unnoticed."""
        for path in sorted(glob.glob(os.path.join(SOURCE, "decks", "*", "README.md"))):
            with open(path, encoding="utf-8") as file:
                self.assertEqual([], rows_of_nobody(file.read()), path)


class Citation(unittest.TestCase):
    def test_version(self):
        """CITATION.cff is for forges and has the version once more: that of the programs."""
        version = call(os.path.join(BIN, "lagamine"), "--version").split()[1]
        with open(os.path.join(SOURCE, ".github", "CITATION.cff"), encoding="utf-8") as file:
            self.assertIn(f"\nversion: {version}\n", file.read())


def page_of(program):
    with open(os.path.join(MADE, "man", program + ".1"), encoding="utf-8") as file:
        return file.read()


class Completion(unittest.TestCase):
    def complete(self, program, *words, folder=SOURCE):
        """What bash would offer for the last of the words."""
        line = " ".join(f"'{word}'" for word in (program, *words))
        script = (f"source '{MADE}/completions/{program}'; COMP_WORDS=({line}); COMP_CWORD={len(words)}; _{program}; "
                  'printf "%s\\n" "${COMPREPLY[@]}"')
        env = dict(os.environ, PATH=BIN + os.pathsep + os.environ["PATH"])
        return set(call("bash", "-c", script, cwd=folder, env=env).split())

    def test_options(self):
        for program in PROGRAMS:
            offered = self.complete(program, "-")
            self.assertLessEqual(options_of(program), offered, program)
        self.assertEqual({"--threads"}, self.complete("lagamine", "deck.lag", "--th"))

    def test_values(self):
        self.assertEqual({"EPLA", "ELA", "ELATH", "EVP-NH"}, self.complete("lagamine", "--law", "E"))
        self.assertEqual({"4", "9"}, self.complete("lagaimport", "--npoint", ""))
        folder = os.path.join(SOURCE, "decks", "cook")
        self.assertEqual({"cook.lag"}, self.complete("lagamine", "c", folder=folder))
        self.assertEqual({"decks"}, self.complete("lagamine", "--out", "de"))
        self.assertEqual({"rib.dxf"}, self.complete("lagaimport", "rib", folder=os.path.join(SOURCE, "decks", "import_rib")))


class Colours(unittest.TestCase):
    def test_cards_are_those_of_the_manual(self):
        with open(os.path.join(SOURCE, "decks", "README.md"), encoding="utf-8") as file:
            headings = re.findall(r"^### `([A-Z0-9]+)`$", file.read(), re.M)
        listed = cards()
        self.assertEqual(len(set(listed)), len(listed))
        # PL8TM has its card too, described with PL8LS and with heat
        self.assertEqual(set(listed), set(headings) | {"PL8TM"})

    def kinds(self, line, patterns):
        """What the grammar says of the words of a line: the rule that begins first wins, then the first in the list."""
        found, place = [], 0
        while place < len(line):
            hits = [(hit.start(), k, hit) for k, (_, rule) in enumerate(patterns) if (hit := rule.search(line, place)) and hit.end() > hit.start()]
            if not hits:
                break
            _, k, hit = min(hits, key=lambda one: one[:2])
            found.append((patterns[k][0], hit.group()))
            place = hit.end()
        return found

    def test_grammar_on_all_decks(self):
        with open(os.path.join(MADE, "vscode", "lagamine.tmLanguage.json"), encoding="utf-8") as file:
            grammar = json.load(file)
        patterns = [(rule.get("name", "title"), re.compile(rule["match"])) for rule in grammar["patterns"]]
        seen = 0
        for deck in DECKS:
            with open(deck, encoding="utf-8") as file:
                for line in file.read().splitlines():
                    kinds = self.kinds(line, patterns)
                    self.assertNotIn("invalid.illegal.lagamine", [kind for kind, _ in kinds], f"{deck}: {line}")
                    if re.match(r"[A-Z]", line):
                        self.assertIn(kinds[0][0], ("title", "keyword.control.lagamine"), line)
                        seen += 1
        self.assertGreater(seen, 500)
        self.assertEqual([("keyword.control.lagamine", "LAW"), ("support.class.lagamine", "EPLA"), ("comment.line.lagamine", "! 3")],
                         self.kinds("LAW    steel EPLA ! 3", patterns))
        self.assertEqual([("variable.parameter.lagamine", "$nx"), ("constant.numeric.lagamine", "-1.E-3")], self.kinds("   $nx -1.E-3", patterns))
        self.assertEqual("invalid.illegal.lagamine", self.kinds("CNT3D billet 2", patterns)[0][0])
        with open(os.path.join(MADE, "vscode", "package.json"), encoding="utf-8") as file:
            package = json.load(file)["contributes"]
        for path in (package["grammars"][0]["path"], package["languages"][0]["configuration"]):
            self.assertTrue(os.path.isfile(os.path.join(MADE, "vscode", path)), path)

    @unittest.skipUnless(shutil.which("vim"), "no vim here")
    def test_vim(self):
        folder = tempfile.mkdtemp(prefix="lagamine-vim-")
        self.addCleanup(shutil.rmtree, folder, True)
        deck = os.path.join(folder, "a.lag")
        with open(deck, "w", encoding="ascii") as file:
            file.write("TITLE  Two words\nLAW    steel EPLA    ! as bought\n   $e 0.3   LINEAR -1.E-3\nCNT3D  billet\n")
        places = {(1, 1): "lagCard", (1, 9): "lagTitle", (2, 1): "lagCard", (2, 8): "", (2, 14): "lagLaw", (2, 23): "lagComment", (3, 4): "lagParameter",
                  (3, 7): "lagNumber", (3, 13): "lagWord", (3, 20): "lagNumber", (4, 1): "lagUnknown"}
        script = os.path.join(folder, "ask.vim")
        with open(script, "w", encoding="ascii") as file:
            file.write("let said = []\n")
            file.writelines(f"call add(said, synIDattr(synID({row}, {column}, 1), 'name'))\n" for row, column in places)
            file.write(f"call writefile(said, '{folder}/said')\nqa!\n")
        subprocess.run(["vim", "-u", "NONE", "-i", "NONE", "-n", "-es", "--cmd", f"set rtp^={MADE}/vim", "-c", "filetype on", "-c", "syntax on",
                        "-c", f"edit {deck}", "-S", script], stdin=subprocess.DEVNULL, capture_output=True, check=False, timeout=60)
        with open(os.path.join(folder, "said"), encoding="ascii") as file:
            self.assertEqual(list(places.values()), file.read().split("\n")[:-1])


if __name__ == "__main__":
    unittest.main(verbosity=2)
