"""Lines as GIS and CIM programs exchange them: GeoJSON features, IEC CIM RDF/XML, and what follows from coordinates."""
