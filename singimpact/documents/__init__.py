"""What is written to be read: derivations, verdicts and misprints as text, LaTeX, PDF and Markdown.

Not here: pictures (`scenes`), the mathematics that is told (`theory`), the verdicts themselves (`claims`).
Files: `steps` (what a document is), `escape`, `breaking`, `rendering`, `compiling`; `verdicts` and its `layout`.
"""
