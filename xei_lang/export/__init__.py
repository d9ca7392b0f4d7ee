"""What leaves the compiler: bundles, recordings, scenes, graphs."""
