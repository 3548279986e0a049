"""Drawings of lines and motions to scale, as SVG for pages: no style of their own, classes of the style sheet only."""
