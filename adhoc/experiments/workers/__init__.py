"""Running a comparison in several processes, of which one owns the language model and the run folder."""
