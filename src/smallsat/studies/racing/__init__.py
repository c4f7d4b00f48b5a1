"""Racing: CubeSats through rings, as published and as it should have been run."""
