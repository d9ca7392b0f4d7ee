"""What cameras say of the world: tags in images, and the frames that they fix."""
