// Keeps the object library non-empty until the room's first source is merged.
