# SPDX-License-Identifier: Apache-2.0
"""What mkdocs does not do by itself: pages from other folders of the project, links to them, a site without a network."""
import pathlib
import posixpath
import re

from mkdocs.exceptions import PluginError
from mkdocs.structure.files import File, Files

TOP = pathlib.Path(__file__).resolve().parents[3]
GUIDE = "src/docs"
OTHER_PAGES = ("MODEL.md", "datasets/ACTIVITY.md", "tests/analysis/COVERAGE.md", "tests/analysis/JOINT_COVERAGE.md",
               "tests/analysis/RECOMMENDATION.md", "tests/benchmarks/RESULTS.md")
PLACES = {posixpath.basename(path): path for path in OTHER_PAGES}
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

    markdown = markdown.replace("<details>", '<details markdown="1">')
    return re.sub(r"(?<!!)\[([^\]]*)\]\(([^)\s]+)\)", link_now, markdown)


def on_page_content(html, page, config, files):
    """A line that continues a command looks like one. Pygments takes it for output unless a backslash precedes it."""
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
