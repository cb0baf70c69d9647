"""What numbers of paired, clustered episodes allow to say; no episodes and no records here."""
