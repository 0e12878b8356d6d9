"""Values as hints describe them, and the bytes and texts that they travel as."""
