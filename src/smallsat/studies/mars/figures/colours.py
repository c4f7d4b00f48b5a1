"""The colours that mean the same in all figures of the study."""

# Of the body axes b1, b2, b3 and -b1.
BODY_COLOURS = ("C1", "C2", "C0", "C1")
# Of the planet's two sides.
DAY_COLOUR, NIGHT_COLOUR = "#e8b48c", "#7a6a63"
# Of the pointing modes, by their names.
MODE_COLOURS = {"sun": "C4", "nadir": "C0", "gmo": "C2"}
MODE_LABELS = {"sun": "Sun", "nadir": "nadir", "gmo": "GMO"}
