"""What all kinds of scenes and all geometries use: reader, series, documents, bands."""
