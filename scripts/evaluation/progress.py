# SPDX-License-Identifier: BSD-3-Clause
"""A progress bar on a terminal, nothing elsewhere."""
import sys
import time


class Progress:
    WIDTH = 30

    def __init__(self, stream=sys.stderr):
        self._stream = stream
        self._shown = stream.isatty()
        self._begin = time.monotonic()

    def update(self, done, total):
        if not self._shown or not total:
            return
        filled = self.WIDTH * done // total
        left = (time.monotonic() - self._begin) / done * (total - done) if done else 0.0
        self._stream.write(f"\r[{'#' * filled}{'.' * (self.WIDTH - filled)}] {done}/{total} runs, about {left:.0f} s left ")
        self._stream.flush()

    def clear(self):
        """Frees the line for other output."""
        if self._shown:
            self._stream.write("\r" + " " * (self.WIDTH + 45) + "\r")
            self._stream.flush()
