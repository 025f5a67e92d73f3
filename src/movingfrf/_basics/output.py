"""Whatever the package writes: made whole, then put in place, or nothing at all."""

from __future__ import annotations

import errno
import os
import secrets
import shutil
from collections.abc import Iterable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from movingfrf._basics.ending import placed
from movingfrf._basics.undoing import undisturbed, undone

# A file: text, which becomes UTF-8 whatever the locale, or its bytes, all at once or in blocks.
Content = str | bytes | Iterable[bytes]


@contextmanager
def replacing(folder: Path) -> Iterator[dict[str, Content | None]]:
    """Collect files and put them in place at the end of the block, all of them or none.

    That the folder can be written shows at the beginning. If the block fails, or the disk is full, everything that
    stood in `folder` stands there still, and a folder made for this goes again.

    Parameters
    ----------
    folder : Path
        Where the files shall appear; made if it does not exist.

    Yields
    ------
    dict of str to str, bytes, iterable of bytes or None
        Empty; takes the files by their names, which may lead into folders within `folder`. What is None shall not
        be there: an earlier file of that name goes with the others' coming.

    Raises
    ------
    OSError
        If the folder cannot be made or written; with the name of what should have been written.
    """
    made = [parent for parent in (folder, *folder.parents) if not parent.exists()]
    # Inside the folder, so that a move is a renaming. Named before it is made: whatever interrupts finds it.
    temporary = folder / f".partial-{secrets.token_hex(4)}"

    def undo() -> None:
        shutil.rmtree(temporary, ignore_errors=True)
        for each in made:
            with suppress(OSError):  # one that holds something stays
                each.rmdir()

    with undone(undo):
        with naming(folder):
            folder.mkdir(parents=True, exist_ok=True)
            temporary.mkdir()
        files: dict[str, Content | None] = {}
        yield files
        moves = []
        for number, (name, content) in enumerate(files.items()):
            file, target = temporary / str(number), folder / name
            _require_room(folder, target)
            if content is not None:
                moves.append((file, target))
                with naming(target):
                    _write(file, content)
                if target.exists():
                    with suppress(OSError):  # a file system without them, or a file of somebody else
                        shutil.copymode(target, file)
        with undisturbed():
            for _, target in moves:
                made[:0] = [parent for parent in target.parents if not parent.exists()]
                with naming(target):
                    target.parent.mkdir(parents=True, exist_ok=True)
            for file, target in moves:
                with naming(target):
                    os.replace(file, target)
            for target in (folder / name for name, content in files.items() if content is None):
                with naming(target):
                    target.unlink(missing_ok=True)
            placed[:] = [*placed[-9:], str(moves[0][1] if len(moves) == 1 else folder)]


def write_whole(path: Path, content: Content) -> None:
    """Write a file, whole or not at all; replaced if it is there.

    Parameters
    ----------
    path : Path
        The file. What a symbolic link points to is written, not the link, and who may read it stays; a hard link
        parts from the others. A device or a pipe takes the content as it is.
    content : str, bytes or iterable of bytes
        What it shall hold.

    Raises
    ------
    OSError
        If it cannot be written, with its name; then what was there is there still.
    """
    if path.exists() and not path.is_file() and not path.is_dir():
        with naming(path):
            _write(path, content)
        return
    place = behind_links(path)
    with replacing(place.parent) as files:
        files[place.name] = content


def behind_links(path: Path) -> Path:
    """Give the place that a path which is a link points to."""
    return path.resolve() if path.is_symlink() else path


@contextmanager
def naming(place: Path) -> Iterator[None]:
    """Name what should have been written, not the temporary place where it failed.

    Parameters
    ----------
    place : Path
        The name.

    Raises
    ------
    OSError
        What went wrong within the block, with that name.
    """
    try:
        yield
    except OSError as error:
        raise OSError(error.errno, error.strerror or str(error), str(place)) from None


def _require_room(folder: Path, target: Path) -> None:
    """Refuse a folder where a file shall stand, and a file where a folder shall."""
    if target.is_dir():
        raise IsADirectoryError(errno.EISDIR, "is a folder", str(target))
    for parent in target.parents[: len(target.parents) - len(folder.parents) - 1]:
        if parent.exists() and not parent.is_dir():
            raise NotADirectoryError(errno.ENOTDIR, "is a file where a folder is needed", str(parent))


def _write(place: Path, content: Content) -> None:
    if isinstance(content, str):
        # What is no character, as in the name of a file in another encoding, has no UTF-8.
        content = content.encode("utf-8", "replace")
    with place.open("wb") as file:
        file.writelines([content] if isinstance(content, bytes) else content)
        file.flush()
        if place.is_file():
            os.fsync(file.fileno())  # some disks are full only then
