"""Names of fields and numbers for readers."""
import math

DIRECTIONS = {"xx": ("xx", "radial"), "yy": ("yy", "axial"), "xy": ("xy", "shear"), "zz": ("zz", "hoop")}
WORDS = {"mises": "von Mises stress", "plastic_strain": "equivalent plastic strain", "plastic_work": "plastic work per volume",
         "stored_work": "work kept by backstress per volume", "plastic_rate": "rate of plastic strain",
         "displacement": "size of the displacement", "applied_force": "applied force at nodes", "temperature": "temperature"}


def field_title(name: str, axisymmetric: bool = False) -> str:
    """`stress_xx` as `stress xx (radial)`, `plastic_strain` as `equivalent plastic strain`."""
    if name in WORDS:
        return WORDS[name]
    base, _, suffix = name.rpartition("_")
    if base and suffix in DIRECTIONS:
        plain, round_axis = DIRECTIONS[suffix]
        return f"{base.replace('_', ' ')} {plain}" + (f" ({round_axis})" if axisymmetric else "")
    return name.replace("_", " ")


def brief(value: float, digits: int = 4) -> str:
    """A number as one reads it: 1 234 567 stays whole, 1.2e-07 stays short."""
    if not math.isfinite(value):
        return "not a number" if math.isnan(value) else ("∞" if value > 0 else "−∞")
    if value == 0:
        return "0"
    if 1e-3 <= abs(value) < 1e7:
        decimals = max(digits - 1 - math.floor(math.log10(abs(value))), 0)
        text = f"{value:,.{decimals}f}".replace(",", "\u202f")
        text = text.rstrip("0").rstrip(".") if "." in text else text
    else:
        mantissa, _, exponent = f"{value:.{digits - 1}e}".partition("e")
        text = f"{mantissa.rstrip('0').rstrip('.')}e{int(exponent)}"
    return text.replace("-", "−")
