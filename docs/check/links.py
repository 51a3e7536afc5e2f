"""Checks a built site: every link, anchor and picture leads somewhere, and nothing is loaded from another host.

    links.py FOLDER

Links to other hosts are allowed, and not fetched.
"""

import re
import sys
from dataclasses import dataclass, field
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

# Attributes by which a page loads something, rather than leads to it.
LOADING = {"src", "srcset", "data", "poster"}


@dataclass
class Page(HTMLParser):
    """What a page names: its anchors, where its links lead, and what it loads."""

    path: Path
    anchors: set[str] = field(default_factory=set)
    links: list[str] = field(default_factory=list)
    loads: list[str] = field(default_factory=list)

    def __post_init__(self) -> None:
        super().__init__()
        self.feed(self.path.read_text(encoding="utf-8"))

    def handle_starttag(self, tag: str, attributes: list[tuple[str, str | None]]) -> None:
        for name, value in attributes:
            if name == "id" or (name == "name" and tag == "a"):
                self.anchors.add(value or "")
            elif name in LOADING or (name == "href" and tag in ("link", "use", "image")):
                self.loads.append(value or "")
            elif name == "href":
                self.links.append(value or "")


def is_elsewhere(address: str) -> bool:
    """True for an address on another host."""
    return bool(urlsplit(address).netloc) or urlsplit(address).scheme in ("http", "https")


def fault_of_link(address: str, page: Page, pages: dict[Path, Page], site: Path) -> str | None:
    parts = urlsplit(address)
    if is_elsewhere(address) or parts.scheme in ("mailto", "data", "javascript"):
        return None
    target = (page.path.parent / unquote(parts.path)).resolve() if parts.path else page.path
    if site != target and site not in target.parents:
        return "leads out of the site"
    if target.is_dir():
        target = target / "index.html"
    if not target.is_file():
        return "leads nowhere"
    if parts.fragment and target in pages and unquote(parts.fragment) not in pages[target].anchors:
        return "names an anchor that is not there"
    return None


def faults_of_page(page: Page, pages: dict[Path, Page], site: Path) -> list[str]:
    faults = [f"loads {address} from another host" for address in page.loads if is_elsewhere(address)]
    for address in [*page.links, *page.loads]:
        if fault := fault_of_link(address, page, pages, site):
            faults.append(f"{address} {fault}")
    # A page that offers to run Rust asks a host for it.
    if 'class="playground"' in page.path.read_text(encoding="utf-8"):
        faults.append("offers to run code on another host")
    return faults


def faults_of_style(path: Path) -> list[str]:
    """What a style sheet loads from another host, and what it names that is not there."""
    faults = []
    for address in re.findall(r"(?:url\(|@import\s*)\s*['\"]?([^'\")\s;]+)", path.read_text(encoding="utf-8")):
        if is_elsewhere(address):
            faults.append(f"loads {address} from another host")
        elif not address.startswith(("data:", "#")) and not (path.parent / urlsplit(address).path).is_file():
            faults.append(f"{address} leads nowhere")
    return faults


def main() -> int:
    site = Path(sys.argv[1]).resolve()
    pages = {path: Page(path) for path in sorted(site.rglob("*.html"))}
    checked = [(path, faults_of_page(page, pages, site)) for path, page in pages.items()]
    checked += [(path, faults_of_style(path)) for path in sorted(site.rglob("*.css"))]
    for path, faults in checked:
        for fault in dict.fromkeys(faults):
            print(f"FAILED: {path.relative_to(site)}: {fault}", file=sys.stderr)
    failed = sum(1 for _, faults in checked if faults)
    # A site without pictures or links would pass in silence.
    if sum(len(page.links) for page in pages.values()) < 500 or sum(len(page.loads) for page in pages.values()) < 100:
        print("FAILED: the site has fewer links or pictures than it must", file=sys.stderr)
        failed += 1
    print(f"{len(checked) - failed} {failed}")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
