"""From goals to configurations: grasp, slide height and swivel of all manipulations, chosen together."""
