# SPDX-License-Identifier: Apache-2.0
"""What mkdocs does not do by itself: pages from other folders of the project, links to them, a site without a network."""
import json
import os
import pathlib
import posixpath
import re
import subprocess

from mkdocs.exceptions import PluginError
from mkdocs.structure.files import File, Files

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
INLINE = re.compile(r"""<script\b|<[a-z]+\b[^>]*\sstyle=""")
EXTERNAL = re.compile(r"""<(?:script|link|img|source|iframe|font)\b[^>]*(?:src|href)=["']?(?:https?:)?//|url\(["']?https?:""")


def on_files(files, config):
    """The guide's pages and pictures without the files that make the site, and the other pages."""
    kept = [file for file in files if "/" not in file.src_path and file.src_path.endswith((".md", ".png", ".css"))]
    style = [File("style.css", str(pathlib.Path(__file__).parent / "theme"), config["site_dir"], False)]
    others = [File(name, str(TOP / posixpath.dirname(path)), config["site_dir"], False) for name, path in PLACES.items()]
    return Files(kept + others + style)


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

    markdown, page.formulas = take_mathematics(markdown)
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


def on_page_content(html, page, config, files):
    """The formulas in place of their tokens. A line that continues a command looks like one. Pygments takes it for output unless a backslash precedes it."""
    rendered = as_mathml(page.formulas) if page.formulas else []
    html = re.sub(r"FORMULA(\d{4})END", lambda found: rendered[int(found[1])], html)
    return re.sub(r'<span class="go">&gt; (.*?)</span>', r'<span class="gp">&gt; </span>\1', html)


def on_post_build(config):
    """The site is the same whenever it is built, refers to no file elsewhere, and to no section that does not exist."""
    site = pathlib.Path(config["site_dir"])
    for name in ("sitemap.xml", "sitemap.xml.gz"):
        (site / name).unlink(missing_ok=True)
    pages = {page.name: page.read_text() for page in site.glob("*.html")}
    for name, text in pages.items():
        for target, section in re.findall(r'href="([^":#]*)#([^"]+)"', text):
            if f'id="{section}"' not in pages[target or name]:
                raise PluginError(f"{name} links to {target}#{section}, which does not exist")
    for file in [*site.rglob("*.html"), *site.rglob("*.css")]:
        if found := EXTERNAL.search(file.read_text()):
            raise PluginError(f"{file.name} refers to the network: {found[0]}")
        if found := INLINE.search(file.read_text()):
            raise PluginError(f"{file.name} has {found[0]}, which the service's content security policy blocks")
