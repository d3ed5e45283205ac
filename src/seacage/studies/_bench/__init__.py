"""The benchmark that others can run: rows of predictions, scored against sealed truths."""
