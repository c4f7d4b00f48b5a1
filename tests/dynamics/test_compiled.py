"""The compiled functions' cache."""

import numba

from smallsat.dynamics import compiled


def test_cache_folder_is_named_after_the_sources(tmp_path, monkeypatch):
    """Another folder after a change in a file with compiled functions, and only then."""
    assert compiled._digest() in numba.config.CACHE_DIR
    monkeypatch.setattr(compiled, "_PACKAGE", tmp_path)
    (tmp_path / "loop.py").write_text("@compiled\ndef f(x): return x")
    first = compiled._digest()
    (tmp_path / "plot.py").write_text("colour = 1")
    assert compiled._digest() == first
    (tmp_path / "loop.py").write_text("@compiled\ndef f(x): return 2 * x")
    assert compiled._digest() != first
