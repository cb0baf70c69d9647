"""Records as flat tables for other programs: CSV and Parquet."""
