"""The numbers that the paper prints, computed again."""
