"""Files that people write in XML: elements with their places, and what is odd about them."""
