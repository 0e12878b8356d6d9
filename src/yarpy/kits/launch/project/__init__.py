"""New projects: files that run, and are tested, before anything is written."""
