"""Films: encoding pictures as H.264, on one thread, so that equal pictures make equal files."""

from collections.abc import Iterator
from pathlib import Path

import imageio_ffmpeg


def write_film(
    pictures: Iterator[bytes], path: Path | str, size: tuple[int, int], rate: int
) -> None:
    """Encode RGBA pictures of a size, pixels (multiples of 16), at a rate, 1/s, atomically."""
    path = Path(path)
    path.parent.mkdir(parents=True, exist_ok=True)
    partial = path.with_name(f".partial-{path.name}")
    writer = imageio_ffmpeg.write_frames(
        str(partial), size, fps=rate, pix_fmt_in="rgba", output_params=["-threads", "1"]
    )
    writer.send(None)
    for picture in pictures:
        writer.send(picture)
    writer.close()
    partial.replace(path)
