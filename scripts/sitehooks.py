"""MkDocs hooks of doc/mkdocs.yml: README.md becomes the home page, and the figures that pages show come from
runs/records. Links in the files are those that work in the repository; here they become links of the site."""
import pathlib
import re

from mkdocs.structure.files import File

ROOT = pathlib.Path(__file__).resolve().parent.parent
PAGES = ROOT / "doc/pages"
FIGURE = re.compile(r"\]\((?:\.\./\.\./)?runs/records/([\w/]+\.png)\)")


def on_files(files, config):
    """Adds the home page and every figure that a page shows."""
    texts = [ROOT / "README.md", *sorted(PAGES.glob("*.md"))]
    for name in sorted({name for path in texts for name in FIGURE.findall(path.read_text())}):
        files.append(File.generated(config, f"figures/{name}", abs_src_path=str(ROOT / "runs/records" / name)))
    files.append(File.generated(config, "index.md", content=(ROOT / "README.md").read_text()))
    return files


def on_page_markdown(markdown, page, config, files):
    """Links to figures and from the home page to the pages."""
    markdown = FIGURE.sub(r"](figures/\1)", markdown)
    return markdown.replace("](doc/pages/", "](") if page.file.src_uri == "index.md" else markdown
