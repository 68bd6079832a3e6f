"""Studies beyond the paper: error maps, error bands, surface modulus."""
