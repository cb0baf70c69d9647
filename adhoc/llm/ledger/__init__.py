"""The ledger: every call of a language model on disk, before it is made and after it is answered."""
