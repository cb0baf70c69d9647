"""The paper's figures of results, from episode records: what they show, and drawing it."""
