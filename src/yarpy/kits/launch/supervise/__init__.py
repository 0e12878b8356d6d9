"""Programs and connections of an application, kept running until they are stopped."""
