"""Language models: the contract, a real one over HTTP, the offline reasoner, and wrappers."""
