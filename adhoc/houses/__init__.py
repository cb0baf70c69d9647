"""Houses: facts of objects, the house model, the ProcTHOR reader, solids, and samples."""
