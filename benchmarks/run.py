"""Run every benchmark in this folder and print its figures. ``make benchmark``."""

import importlib.util
from pathlib import Path


def main() -> None:
    """Load each ``*_speed.py`` and print what its ``measure`` returns."""
    for path in sorted(Path(__file__).parent.glob("*_speed.py")):
        spec = importlib.util.spec_from_file_location(path.stem, path)
        assert spec and spec.loader
        module = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(module)
        print(path.stem)
        for name, value in module.measure().items():
            print(f"  {name}: {value:.3g}")


if __name__ == "__main__":
    main()
