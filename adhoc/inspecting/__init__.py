"""Looking into one episode: what happened, what was decided and why, as pages, pictures and films."""
