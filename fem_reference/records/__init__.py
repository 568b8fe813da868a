"""Records in binary formats of instruments and other programs, read by their libraries.

A file ``FORMAT.py`` per format has a function ``channels``, a context manager that opens a file and
gives its `Channel`s. It states them from the file's headers alone; samples are read when the
channels are written, one after the other. What it cannot read it says in a ``ValueError``, without
the name of the file.
"""
