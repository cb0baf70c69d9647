"""Training the learned parts from nothing: houses, samples, demonstrations, fitting, model cards."""
