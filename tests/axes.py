"""What axes of Matplotlib show."""


def legend(ax):
    """Texts of the legend."""
    return [text.get_text() for text in ax.get_legend().get_texts()]


def curves(ax):
    """Points (n, 2) of each line by its label."""
    return {line.get_label(): line.get_xydata() for line in ax.get_lines()}
