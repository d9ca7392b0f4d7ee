"""From goals to configurations: which grasp, slide height and swivel each manipulation uses, chosen together."""
