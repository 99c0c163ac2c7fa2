"""Builds the package for pip with the standard library alone (PEP 517, PEP 660), so that it installs without the net."""
from __future__ import annotations

import base64
import hashlib
import pathlib
import tomllib
import zipfile

_HERE = pathlib.Path(__file__).parent
_PROJECT = tomllib.loads((_HERE / "pyproject.toml").read_text())["project"]
_NAME = f"{_PROJECT['name']}-{_PROJECT['version']}"


def _write(wheel_directory: str, files: dict[str, bytes]) -> str:
    info = f"{_NAME}.dist-info"
    files[f"{info}/METADATA"] = (
        f"Metadata-Version: 2.1\nName: {_PROJECT['name']}\nVersion: {_PROJECT['version']}\n"
        f"Summary: {_PROJECT['description']}\nLicense: {_PROJECT['license']['text']}\n"
        f"Requires-Python: {_PROJECT['requires-python']}\n").encode()
    files[f"{info}/WHEEL"] = b"Wheel-Version: 1.0\nGenerator: galatea\nRoot-Is-Purelib: true\nTag: py3-none-any\n"
    record = ""
    for name, content in files.items():
        digest = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b"=").decode()
        record += f"{name},sha256={digest},{len(content)}\n"
    files[f"{info}/RECORD"] = f"{record}{info}/RECORD,,\n".encode()
    wheel = f"{_NAME}-py3-none-any.whl"
    with zipfile.ZipFile(pathlib.Path(wheel_directory) / wheel, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in files.items():
            archive.writestr(zipfile.ZipInfo(name), content)  # dated 1980: the same bytes every time
    return wheel


def build_wheel(wheel_directory: str, config_settings: object = None, metadata_directory: str | None = None) -> str:
    sources = sorted([*_HERE.glob("galatea/*.py"), _HERE / "galatea/py.typed"])
    return _write(wheel_directory, {str(path.relative_to(_HERE)): path.read_bytes() for path in sources})


def build_editable(wheel_directory: str, config_settings: object = None, metadata_directory: str | None = None) -> str:
    return _write(wheel_directory, {f"{_PROJECT['name']}.pth": f"{_HERE}\n".encode()})
