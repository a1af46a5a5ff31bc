"""A settings file of Safe Exam Browser: opened, it locks the computer and leads to the exam.

In: an address and a password. Out: a file to hand out, and its Config Key, which the browser proves
with each request. The program computes that key from all settings in the file, so who changes one
is not let in.
"""

from __future__ import annotations

import hashlib
import json
import plistlib
from collections.abc import Mapping
from pathlib import Path
from xml.parsers.expat import ExpatError

from quizgen.core.errors import ClassError
from quizgen.core.files import PRIVATE, write_all

FILE = "exam.seb"
END = "/seat/end"
"""The address at which Safe Exam Browser ends: a link there frees who has handed in."""


def write_settings_file(folder: Path, address: str, quit_password: str) -> Path:
    """Write the settings file of an exam into a folder; return its path.

    Parameters
    ----------
    folder : pathlib.Path
    address : str
        Of the server, as students reach it, without a slash at the end.
    quit_password : str
        Without it students may quit at any time, and say twice that they mean it.
    """
    data = plistlib.dumps(_build_settings(address, quit_password))
    return write_all(folder, {FILE: data}, PRIVATE)[0]


def _build_settings(address: str, quit_password: str) -> dict[str, str | int | bool]:
    """Return settings by the names that the program has for them; all others stay as they are."""
    hashed = hashlib.sha256(quit_password.encode()).hexdigest() if quit_password else ""
    return {
        "allowBrowsingBackForward": False,
        "allowQuit": True,
        "allowSpellCheck": False,
        "browserWindowAllowReload": True,
        "examSessionClearCookiesOnEnd": True,
        "examSessionClearCookiesOnStart": True,
        "hashedQuitPassword": hashed,
        "quitURL": address + END,
        "quitURLConfirm": False,
        "sebConfigPurpose": 0,  # begins an exam, and does not set up the computer
        "sendBrowserExamKey": True,
        "showReloadButton": True,
        "showTime": True,
        "startURL": f"{address}/",
    }


def compute_config_key(settings: Mapping[str, object]) -> str:
    """Return the Config Key of settings: the SHA-256 of their JSON, in hexadecimal digits.

    Names stand in their order whatever their capitals, without blanks, and the version of the
    program that wrote them is no setting.
    """
    names = sorted(settings.keys() - {"originatorVersion"}, key=str.casefold)
    rows = {name: settings[name] for name in names}
    text = json.dumps(rows, ensure_ascii=False, separators=(",", ":"))
    return hashlib.sha256(text.encode()).hexdigest()


def read_config_key(path: Path) -> str:
    """Return the Config Key of a settings file.

    Raises
    ------
    ClassError
        If it is not there, or is none that ``write_settings_file`` wrote.
    """
    if not path.exists():
        raise ClassError(f"{path}: is not there yet (quizgen class admit)")
    try:
        settings = plistlib.loads(path.read_bytes())
        return compute_config_key({str(name): value for name, value in settings.items()})
    except (plistlib.InvalidFileException, ExpatError, AttributeError, TypeError, ValueError):
        raise ClassError(
            f"{path}: was changed by another program; write its Config Key into config_keys, "
            "without safe_exam_browser"
        ) from None
