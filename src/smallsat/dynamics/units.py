"""Units that documents print in, in SI units: m and s."""

KM = 1000.0
MINUTE = 60.0
HOUR = 3600.0
DAY = 86400.0
