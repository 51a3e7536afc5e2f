"""Photographs and outputs in an object store: brought to a temporary folder for a piece, and put home after it.

`pyarrow` is needed for URLs only. Its file systems are S3, Google Cloud Storage, Azure and folders; they find regions, endpoints
and credentials as the stores' own programs do (environment, configuration files, the machine's role).
"""

import json
import os
import shutil
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

Picture = tuple[str, str]  # photograph and name
# Files fetched at once: a store answers slowly, and to many at a time.
AT_ONCE = 8


def is_url(place: str) -> bool:
    return "://" in place


def record_of(output: str) -> str:
    """Where `drypoint batch` keeps what an output was drawn from."""
    folder, _, file = output.rpartition("/")
    return f"{folder}/.drypoint/{file}.json"


class Stores:
    """The file systems behind URLs; each is opened once."""

    def __init__(self) -> None:
        self.roots: dict[str, tuple] = {}

    def find(self, url: str) -> tuple:
        """The file system and the path in it. Only the root goes through its parser: paths may have spaces and the like."""
        from pyarrow import fs

        scheme, _, rest = url.partition("://")
        bucket, _, path = rest.partition("/")
        root = f"{scheme}://{bucket or '/'}"
        if root not in self.roots:
            self.roots[root] = fs.FileSystem.from_uri(root)
        files, above = self.roots[root]
        return files, f"{above.rstrip('/')}/{path}"

    def fetch(self, url: str, target: Path) -> bool:
        """Copies a file here; False if there is none."""
        files, path = self.find(url)
        if not files.get_file_info(path).is_file:
            return False
        target.parent.mkdir(parents=True, exist_ok=True)
        with files.open_input_stream(path) as source, target.open("wb") as copy:
            shutil.copyfileobj(source, copy)
        return True

    def put(self, source: Path, url: str) -> None:
        """Copies a file there, whole or not at all: an object appears when it is closed, a file of a folder is renamed."""
        files, path = self.find(url)
        is_folder = files.type_name == "local"
        written = f"{path}.{os.urandom(8).hex()}.part" if is_folder else path
        if is_folder:
            files.create_dir(os.path.dirname(path), recursive=True)
        with files.open_output_stream(written) as copy:
            copy.write(source.read_bytes())
        if is_folder:
            files.move(written, path)


class Brought:
    """A piece of a manifest, in a `with` block with all of it on this machine. Files that have no URL stay where they are."""

    def __init__(self, pictures: list[Picture], output: str) -> None:
        self.stores = Stores()
        self.home_pictures = pictures
        self.home_output = output

    def __enter__(self) -> "Brought":
        self.folder, self.output, self.pictures = None, self.home_output, self.home_pictures
        if not any(map(is_url, [self.output, *(photo for photo, _ in self.pictures)])):
            return self
        self.folder = Path(tempfile.mkdtemp(prefix="drypoint-"))
        if is_url(self.output):
            self.output = f"{self.folder}/out/{self.output.rpartition('/')[2]}"
        try:
            with ThreadPoolExecutor(AT_ONCE) as pool:
                self.pictures = list(pool.map(self.bring, range(len(self.home_pictures)), self.home_pictures))
        except BaseException:
            shutil.rmtree(self.folder)
            raise
        return self

    def __exit__(self, *_: object) -> None:
        if self.folder:
            shutil.rmtree(self.folder)

    def bring(self, number: int, picture: Picture) -> Picture:
        photo, name = picture
        if is_url(self.home_output):
            # What is drawn already, and its record, by which `drypoint batch` skips it.
            home, here = self.outputs(name)
            if self.stores.fetch(record_of(home), Path(record_of(here))):
                self.stores.fetch(home, Path(here))
        if not is_url(photo):
            return picture
        # The file's own name is kept, since a drawing's title says it. If there is no such file, drypoint will say so.
        target = self.folder / "in" / str(number) / photo.rpartition("/")[2]
        self.stores.fetch(photo, target)
        return str(target), name

    def outputs(self, name: str) -> tuple[str, str]:
        """A picture's output at home and here."""
        return self.home_output.replace("{name}", name), self.output.replace("{name}", name)

    def put_home(self, lines: list[dict]) -> list[dict]:
        """Puts new outputs home; returns the lines with the names of home."""
        photos = {name: (home, here) for (home, name), (here, _) in zip(self.home_pictures, self.pictures)}
        for number, line in enumerate(lines):
            home, here = self.outputs(line["name"])
            if home != here and line["status"] == "done":
                # The record last: it vouches for the output.
                self.stores.put(Path(here), home)
                self.stores.put(Path(record_of(here)), record_of(home))
            text = json.dumps(line)
            for there, local in [photos[line["name"]], (home, here)]:
                text = text.replace(json.dumps(local)[1:-1], json.dumps(there)[1:-1])
            lines[number] = json.loads(text)
        return lines
