//! RON files: floors, control kinds and layouts as written, checked into the types the engine uses.
