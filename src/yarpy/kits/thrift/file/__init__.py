"""`.thrift` files: read, with those that they include, and checked."""
