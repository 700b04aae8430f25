"""The project's version. Written by proto/generate.py from CMakeLists.txt."""

__version__ = "0.1.0"
