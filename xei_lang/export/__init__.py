"""What a compilation leaves on disk: the bundle, its rosbag, its scene."""
