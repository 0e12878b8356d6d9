"""Files of MATLAB, as robometry writes them."""
