"""Tables and figures from episode records, and from nothing else."""
