"""The representations handed from stage to stage: frozen values, each with a text form and a verifier."""
