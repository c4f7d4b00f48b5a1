"""Racing: CubeSats through rings, as its listings have it and as it should have been run."""
