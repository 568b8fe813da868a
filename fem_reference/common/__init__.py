"""What all kinds of scenes and all geometries use: decoding, bodies, fields, bands."""
