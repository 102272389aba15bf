"""Times this engine and its peers in one run and writes a report; see README.md beside this folder."""
