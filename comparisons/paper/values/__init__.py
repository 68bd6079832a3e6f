"""Numbers that the paper prints, computed again."""
