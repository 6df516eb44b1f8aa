// The project file: see the header.
