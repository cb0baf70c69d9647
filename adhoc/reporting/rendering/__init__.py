"""Tables and documents as text for the terminal, Markdown, LaTeX and HTML."""
