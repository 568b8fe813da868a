"""The mesh of an elastic body between the contacts, from a CAD part or a mesh file."""
