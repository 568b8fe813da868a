"""The flexibly mounted seal seat (section 4.4 of the paper), in three dimensions."""
