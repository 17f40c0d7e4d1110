#!/usr/bin/env python3
"""The documents as a site: every link of every text leads somewhere, chapters and cards have their pages; built by MkDocs where it is installed."""
import glob
import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

HERE = os.path.dirname(os.path.abspath(__file__))
SOURCE = os.path.abspath(os.environ.get("LAGAMINE_SOURCE") or os.path.dirname(os.path.dirname(HERE)))
BIN = os.path.abspath(os.environ.get("LAGAMINE_BIN") or os.path.join(SOURCE, "build", "bin"))
sys.path.insert(0, os.path.join(SOURCE, "src", "documents"))
sys.dont_write_bytecode = True
from code_pages import ford, offline  # noqa: E402
from site_text import Links, Page, finished, split_manual  # noqa: E402


def page(name, source, text):
    return Page(name, source, name, text.splitlines())


class Texts(unittest.TestCase):
    def test_links_follow_headings_to_their_pages(self):
        manual = split_manual("decks/README.md", "# M\nsee [a\ncard](#b1)\n## One\n### `B1`\ntext\n### After\n[up](#m) [deck](d/README.md#two)\n")
        self.assertEqual(["manual/index.md", "manual/one.md", "cards/b1.md", "manual/after.md"], [one.name for one in manual])
        deck = page("decks/d.md", "decks/d/README.md", "# D\n## Two\n[c](../README.md#b1) [no](../README.md#b2) [nor](x.lag) [out](https://a.b/c#d)")
        links = Links([*manual, deck])
        texts = [finished(one, links, SOURCE) for one in (*manual, deck)]
        self.assertIn("[a\ncard](../cards/b1.md#b1)", texts[0])
        self.assertIn("# B1\n" if "# B1" in texts[2] else "# `B1`\n", texts[2])
        self.assertIn("[up](index.md#m) [deck](../decks/d.md#two)", texts[3])
        self.assertIn("[c](../cards/b1.md#b1)", texts[4])
        self.assertIn("https://a.b/c#d", texts[4])
        self.assertEqual(["decks/d/README.md: ../README.md#b2: no such heading", "decks/d/README.md: x.lag: no such file"], links.lost)

    def test_what_github_reads_is_written_as_markdown_wants_it(self):
        text = finished(page("a.md", "a.md", "words\n- item\n  more\n- item\n\nwords\n| a |\n|---|\n| `x\\|y` |\n```lag skeleton\n- no item\n[no](link)\n```"),
                        Links([]), SOURCE)
        self.assertEqual("words\n\n- item\n  more\n- item\n\nwords\n\n| a |\n|---|\n| `x|y` |\n\n```lag\n- no item\n[no](link)\n```\n", text)


class Code(unittest.TestCase):
    def test_pages_of_ford_fetch_nothing(self):
        """What FORD 6.2 writes: scripts from a network, for old browsers and not; a link in a link; places that its pages of interfaces have not."""
        text = """<!--[if lt IE 9]><script src="https://a.b/old.js"></script><![endif]--><script src="./js/own.js"></script>
<script type="text/x" async src='https://c.d/x.js?y=Z'></script><a href='<a href="http://e.f/iso">iso</a>'>iso</a>
<a href="../interface/exp.html#moduleprocedure-exponential">e</a><a href="#variable-a">a</a>"""
        self.assertEqual("""<script src="./js/own.js"></script>
<a href="http://e.f/iso">iso</a>
<a href="../interface/exp.html">e</a><a href="#variable-a">a</a>""", offline(text).replace("\n\n", "\n"))

    def test_other_versions_are_not_asked(self):
        folder = tempfile.mkdtemp(prefix="lagamine-ford-")
        self.addCleanup(shutil.rmtree, folder, True)
        program, path = os.path.join(folder, "ford"), os.environ["PATH"]
        self.addCleanup(os.environ.update, PATH=path)
        os.environ["PATH"] = folder + os.pathsep + path
        for version, found in (("6.2.5", program), ("7.0.13", None)):
            with open(program, "w", encoding="ascii") as file:
                file.write(f"#!/bin/sh\necho 'FORD, version {version}'\n")
            os.chmod(program, 0o755)
            self.assertEqual(found, ford())


class Gallery(unittest.TestCase):
    def test_every_deck_has_its_picture(self):
        decks = sorted(glob.glob(os.path.join(SOURCE, "decks", "*", "*.lag")))
        self.assertGreater(len(decks), 40)
        for deck in decks:
            folder, name = os.path.split(deck)
            picture = f"picture_{name[:-len('.lag')]}.png"
            with open(os.path.join(folder, picture), "rb") as file:
                data = file.read()
            self.assertEqual(b"\x89PNG", data[:4], picture)
            self.assertLess(len(data), 100_000, picture)
            with open(os.path.join(folder, "README.md"), encoding="utf-8") as file:
                self.assertIn(f"]({picture})", file.read())
        shown = glob.glob(os.path.join(SOURCE, "decks", "*", "picture_*.png"))
        for path in shown:
            self.assertIn(re.sub(r"picture_(.*)[.]png$", r"\1.lag", path), decks, "a picture of no deck")

    def test_figures_of_the_cards(self):
        """Each is drawn from the manual's example, and shown by the manual."""
        folder = tempfile.mkdtemp(prefix="lagamine-figures-")
        self.addCleanup(shutil.rmtree, folder, True)
        subprocess.run([sys.executable, os.path.join(SOURCE, "src", "documents", "card_figures.py"), "--programs", BIN, "--out", folder], check=True,
                       stdout=subprocess.DEVNULL)
        with open(os.path.join(SOURCE, "decks", "README.md"), encoding="utf-8") as file:
            shown = set(re.findall(r"\]\(figures/([^)]*)\)", file.read()))
        self.assertEqual(shown, set(os.listdir(folder)))
        self.assertEqual(shown, set(os.listdir(os.path.join(SOURCE, "decks", "figures"))))
        for name in shown:
            for place in (folder, os.path.join(SOURCE, "decks", "figures")):
                self.assertTrue(2000 < os.path.getsize(os.path.join(place, name)) < 100_000, name)

    def test_the_command_draws(self):
        """A run and its picture: of a deck with a field, and of one whose fields are the same everywhere."""
        import gallery
        folder = tempfile.mkdtemp(prefix="lagamine-gallery-")
        self.addCleanup(shutil.rmtree, folder, True)
        for name, field in (("cook", "mises"), ("upsetting_frictionless", None)):
            out = os.path.join(folder, name)
            subprocess.run([os.path.join(BIN, "lagamine"), os.path.join(SOURCE, "decks", name, name + ".lag"), "--out", out, "--quiet"], check=True)
            self.assertEqual(field, gallery.field_of(gallery.Run(out), name)[0])
            size = gallery.save(gallery.draw(out, name), out + ".png")
            self.assertTrue(1000 < size < gallery.MOST_BYTES, size)


class Site(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.mkdtemp(prefix="lagamine-site-")
        cls.addClassCleanup(shutil.rmtree, cls.folder, True)
        whole = [] if shutil.which("mkdocs") else ["--pages-only"]
        cls.done = subprocess.run([sys.executable, os.path.join(SOURCE, "src", "documents", "site.py"), "--root", SOURCE, "--programs", BIN,
                                   "--out", cls.folder, *whole], text=True, capture_output=True, check=False, timeout=300)

    def test_no_link_is_lost(self):
        self.assertEqual((0, ""), (self.done.returncode, self.done.stderr))
        self.assertRegex(self.done.stdout, r"^\d+ pages in ")

    def test_cards_laws_and_decks_have_pages(self):
        def names(part):
            return {os.path.basename(path)[:-3] for path in glob.glob(os.path.join(self.folder, "pages", part, "*.md"))} - {"index"}
        lagamine = os.path.join(BIN, "lagamine")
        cards = subprocess.run([lagamine, "--cards"], text=True, capture_output=True, check=True).stdout.lower().split()
        self.assertEqual(set(cards) - {"pl8tm"}, names("cards"))
        laws = subprocess.run([lagamine, "--law"], text=True, capture_output=True, check=True).stdout.lower().splitlines()
        self.assertEqual({line.split()[0] for line in laws}, names("laws"))
        decks = {os.path.basename(os.path.dirname(path)) for path in glob.glob(os.path.join(SOURCE, "decks", "*", "README.md"))}
        self.assertEqual(decks, names("decks"))

    def test_commands_of_the_recipes_are_read(self):
        """Decks and parameters are there: each run is asked for as --check."""
        with open(os.path.join(SOURCE, "decks", "RECIPES.md"), encoding="utf-8") as file:
            commands = re.findall(r"^lagamine (.*)$", "\n".join(re.findall(r"```sh\n(.*?)```", file.read(), re.S)), re.M)
        self.assertGreater(len(commands), 5)
        for command in commands:
            words = re.sub(r"--out \S+", "", command).split()
            done = subprocess.run([os.path.join(BIN, "lagamine"), *words, *([] if "--check" in words else ["--check"])], cwd=SOURCE, text=True,
                                  capture_output=True, check=False)
            self.assertEqual(0, done.returncode, f"{command}: {done.stderr}")


if __name__ == "__main__":
    unittest.main(verbosity=2)
