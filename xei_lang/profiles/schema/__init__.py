"""The shape of each profile as a pydantic model. Imported only when a profile has changed, or to publish its
JSON Schema.
"""
