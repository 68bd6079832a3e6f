"""Agreement of the two references on solids whose modulus is any function of the depth."""
