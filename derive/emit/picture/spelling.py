"""Labels as text: parameters as inputs of the function block, products with a dot, angles of one turn as 360°."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import sympy as sp


def spelled(label: sp.Expr, names: Mapping[str, str]) -> str:
    """`A3 - A4*pitch_zc/360` → `A3 − A4·dPitchZC/360°`."""
    terms = sorted(sp.Add.make_args(label), key=lambda t: (t.could_extract_minus_sign(), sp.count_ops(t), str(t)))
    sizes = {abs(term.as_coeff_Mul()[0]) for term in terms}
    if len(terms) > 1 and sizes != {1} and len(sizes) == 1:
        (common,) = sizes
        return _over(f"({spelled(sp.expand(label / common), names)})", common)
    text = ""
    for term in terms:
        minus = term.could_extract_minus_sign()
        text += (" − " if minus else " + ") if text else ("−" if minus else "")
        text += _product(-term if minus else term, names)
    return text


def _product(term: sp.Expr, names: Mapping[str, str]) -> str:
    coefficient, rest = term.as_coeff_Mul()
    if rest == 1:
        return f"{float(coefficient):g}"
    factors = sorted(str(f) for f in sp.Mul.make_args(rest))
    return _over("·".join(names.get(f, f) for f in factors), coefficient)


def _over(text: str, coefficient: sp.Rational) -> str:
    if coefficient.q != 1:
        text += f"/{coefficient.q}" + ("°" if coefficient.q == 360 else "")
    return text if coefficient.p == 1 else f"{coefficient.p}·{text}"


def in_short(names: Sequence[str]) -> str:
    """Names that differ in their last letter, as one of them and the letters of the others."""
    begins = {name[:-1] for name in names}
    if len(names) > 1 and len(begins) == 1 and all(name[-1:].isalpha() for name in names):
        return ", ".join([names[0], *(name[-1] for name in names[1:])])
    return ", ".join(names)
