# simulator targets
