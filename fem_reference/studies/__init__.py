"""What the reference says about itself: cost against error, bands against the truth."""
