"""The corpus: what the generated package answered, recorded once, so that a change inside the compiler changes no
answer.

Everything here knows the public calls of the package `softkin` alone, and none of the compiler.
`recorded/<mechanism>.json.xz` holds questions (parameters, axes, frames, configurations, references; exact to the last
bit) and the answers to them.

    python -m tests.corpus.record                        ask the recorded questions again, and keep the new answers
    python -m tests.corpus.record --anew                 draw new questions (always the same for the same package), too
    python -m tests.corpus.compare                       hold generated/python against what is recorded
    python -m tests.corpus.compare --package NEW/generated/python --with OLD/generated/python
                                                         hold one package against another one, on the recorded questions

Each takes names of mechanisms, too, and `--package DIR` for a package other than generated/python.
"""
