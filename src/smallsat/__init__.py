"""Five published studies of small-satellite guidance and control, rerun and judged."""
