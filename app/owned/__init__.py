"""What an owner keeps in the service beside jobs, conductors and aerodynamic tables, and how files are read."""
