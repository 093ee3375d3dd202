# ros targets
