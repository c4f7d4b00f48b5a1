"""The printed scores of both races."""

# Tables 2 and 4: cost, time, accuracy, minimum possible cost.
PRINTED = {
    ("scenario-1", "Eeny"): (2003.944, 1911.847, 92.097, 1052.421),
    ("scenario-1", "Meeny"): (1338.647, 1312.432, 26.215, 703.454),
    ("scenario-1", "Miny"): (916.067, 874.768, 41.299, 477.352),
    ("scenario-1", "Mo"): (2128.998, 1435.305, 693.692, 600.442),
    ("scenario-2", "Eeny"): (1574.212, 965.223, 608.989, 526.207),
    ("scenario-2", "Meeny"): (1133.655, 1085.772, 47.883, 558.876),
    ("scenario-2", "Miny"): (1761.798, 1096.043, 665.755, 555.450),
    ("scenario-2", "Mo"): (1161.586, 1018.303, 143.283, 516.700),
}
