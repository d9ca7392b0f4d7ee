"""How each representation reads as text: one file a form, all through `canonical`."""
