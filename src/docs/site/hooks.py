# SPDX-License-Identifier: Apache-2.0
"""What mkdocs does not do by itself: pages from other folders of the project, links to them, a site without a network."""
import html.parser
import itertools
import json
import os
import pathlib
import posixpath
import re
import subprocess

from mkdocs.exceptions import PluginError
from mkdocs.structure.files import File, Files

BLOCKS = ("p", "li", "tr", "pre")
PARAGRAPHS = []  # of all pages, for the search

TOP = pathlib.Path(__file__).resolve().parents[3]
GUIDE = "src/docs"
OTHER_PAGES = ("MODEL.md", "datasets/ACTIVITY.md", "tests/analysis/COVERAGE.md", "tests/analysis/JOINT_COVERAGE.md",
               "tests/simulator/RECOMMENDATION.md", "tests/benchmarks/RESULTS.md")
PLACES = {posixpath.basename(path): path for path in OTHER_PAGES}
# Mathematics as GitHub has it: $$...$$ on lines of its own, $...$ in a line; not in code.
MATHEMATICS = re.compile(r"```.*?```|`[^`\n]*`|\$\$(.+?)\$\$|\$([^$\n]+?)\$", re.DOTALL)
RENDER = """
const katex = require('katex');
const formulas = JSON.parse(require('fs').readFileSync(0));
const render = ([text, displayMode]) => katex.renderToString(text, {displayMode, output: 'mathml', strict: 'ignore'});
console.log(JSON.stringify(formulas.map(render)));
"""
# The tables of warnings: a row begins with one code or several.
ROW_OF_CODES = re.compile(r"^\| (`[a-z_]+`(?:, `[a-z_]+`)*) \|", re.MULTILINE)
CODES = "| code | meaning |\n|---|---|\n"
INLINE = re.compile(r"""<script\b(?![^>]*\ssrc=)|<[a-z]+\b[^>]*\sstyle=""")
EXTERNAL = re.compile(r"""<(?:script|link|img|source|iframe|font)\b[^>]*(?:src|href)=["']?(?:https?:)?//|url\(["']?https?:""")


def on_files(files, config):
    """The guide's pages and pictures without the files that make the site, and the other pages."""
    kept = [file for file in files if "/" not in file.src_path and file.src_path.endswith((".md", ".png", ".svg"))]
    theme = [File(name, str(pathlib.Path(__file__).parent / "theme"), config["site_dir"], False) for name in ("style.css", "search.js")]
    others = [File(name, str(TOP / posixpath.dirname(path)), config["site_dir"], False) for name, path in PLACES.items()]
    return Files(kept + others + theme)


def with_anchors(markdown):
    """Each code in the tables of warnings as the place that reports link to: reference.html#gaps."""
    def row_now(row):
        return "| " + re.sub(r"`(\w+)`", r'<code id="\1">\1</code>', row[1]) + " |"

    before, *tables = markdown.split(CODES)
    split = [table.split("\n\n", 1) for table in tables]
    return before + "".join(CODES + "\n\n".join([ROW_OF_CODES.sub(row_now, table), *rest]) for table, *rest in split)


def on_page_markdown(markdown, page, config, files):
    """Links to pages of the site lead there. Other files of the project are not in the site: their links become names."""
    folder = posixpath.dirname(PLACES.get(page.file.src_path, f"{GUIDE}/{page.file.src_path}"))

    def link_now(link):
        words, target, place = link[1], *(link[2] + "#").split("#")[:2]
        path = posixpath.normpath(posixpath.join(folder, target))
        name = posixpath.basename(path)
        if "://" in target or not target or not (TOP / path).exists():
            return link[0]  # mkdocs reports a link that leads nowhere
        if PLACES.get(name) == path or posixpath.dirname(path) == GUIDE:
            return f"[{words}]({name}{'#' + place if place else ''})"
        return words if words.strip("`") == path else f"{words} (`{path}`)"

    markdown, page.formulas = take_mathematics(with_anchors(markdown))
    markdown = markdown.replace("<details>", '<details markdown="1">')
    return re.sub(r"(?<!!)\[([^\]]*)\]\(([^)\s]+)\)", link_now, markdown)


def take_mathematics(markdown):
    """The text with a token for each formula, and the formulas: [LaTeX, whether it stands by itself]."""
    formulas = []

    def token(found):
        if not (found[1] or found[2]):
            return found[0]  # code
        formulas.append([(found[1] or found[2]).strip(), bool(found[1])])
        return f"FORMULA{len(formulas) - 1:04}END"

    return MATHEMATICS.sub(token, markdown), formulas


def as_mathml(formulas):
    """MathML, which browsers show without a script or a font, by KaTeX (Debian package katex)."""
    environment = {**os.environ, "NODE_PATH": "/usr/share/nodejs"}
    done = subprocess.run(["node", "-e", RENDER], input=json.dumps(formulas), env=environment, capture_output=True, text=True)
    if done.returncode != 0:
        raise PluginError(f"KaTeX cannot render the mathematics; is the package katex installed? {done.stderr.strip()[-500:]}")
    return json.loads(done.stdout)


class Paragraphs(html.parser.HTMLParser):
    """The paragraphs, items, rows and listings of a page: (id, heading above it, text)."""

    def __init__(self, content):
        super().__init__()
        self.found, self.open, self.heading, self.is_heading, self.is_hidden = [], [], "", False, False
        self.feed(content)

    def handle_starttag(self, tag, attributes):
        if re.fullmatch(r"h[1-6]", tag):
            self.heading, self.is_heading = "", True
        elif tag in BLOCKS:
            self.found.append([dict(attributes).get("id"), self.heading, ""])
            self.open.append(self.found[-1])
        self.is_hidden = tag == "annotation" or (tag == "a" and ("class", "headerlink") in attributes)

    def handle_endtag(self, tag):
        if re.fullmatch(r"h[1-6]", tag):
            self.is_heading = False
        elif tag in BLOCKS:
            self.open.pop()
        self.handle_data(" " if tag == "td" else "")
        self.is_hidden = False

    def handle_data(self, data):
        if self.is_hidden:
            return
        if self.is_heading:
            self.heading += data
        elif self.open:
            self.open[-1][2] += data


def on_page_content(html, page, config, files):
    """The formulas in place of their tokens; an id for each paragraph, and its text for the search. A line that continues a
    command looks like one. Pygments takes it for output unless a backslash precedes it."""
    rendered = as_mathml(page.formulas) if page.formulas else []
    html = re.sub(r"FORMULA(\d{4})END", lambda found: rendered[int(found[1])], html)
    html = re.sub(r'<span class="go">&gt; (.*?)</span>', r'<span class="gp">&gt; </span>\1', html)
    numbers = itertools.count(1)
    html = re.sub(rf"<({'|'.join(BLOCKS)})>", lambda found: f'<{found[1]} id="p{next(numbers)}">', html)
    html = html.replace("<pre ", '<pre tabindex="0" ').replace("<table>", '<table tabindex="0">')  # the keyboard scrolls them
    for name, heading, text in Paragraphs(html).found:
        if text.strip():
            PARAGRAPHS.append({"url": f"{page.file.url}#{name}", "page": page.title, "heading": heading, "text": " ".join(text.split())})
    return html


def on_post_build(config):
    """The site is the same whenever it is built, refers to no file elsewhere, and to no section that does not exist."""
    site = pathlib.Path(config["site_dir"])
    for name in ("sitemap.xml", "sitemap.xml.gz"):
        (site / name).unlink(missing_ok=True)
    (site / "search_index.js").write_text(f"'use strict';\nconst kParagraphs = {json.dumps(PARAGRAPHS, ensure_ascii=False, indent=0)};\n")
    pages = {page.name: page.read_text() for page in site.glob("*.html")}
    for name, text in pages.items():
        places = re.findall(r'\sid="([^"]+)"', text)
        if repeated := {place for place in places if places.count(place) > 1}:
            raise PluginError(f"{name} has {', '.join(sorted(repeated))} twice")
        for target, section in re.findall(r'href="([^":#]*)#([^"]+)"', text):
            if f'id="{section}"' not in pages[target or name]:
                raise PluginError(f"{name} links to {target}#{section}, which does not exist")
    for file in [*site.rglob("*.html"), *site.rglob("*.css")]:
        if found := EXTERNAL.search(file.read_text()):
            raise PluginError(f"{file.name} refers to the network: {found[0]}")
        if found := INLINE.search(file.read_text()):
            raise PluginError(f"{file.name} has {found[0]}, which the service's content security policy blocks")
