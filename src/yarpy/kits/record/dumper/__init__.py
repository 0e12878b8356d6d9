"""The folders of C++ yarpdatadumper."""
