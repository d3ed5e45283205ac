"""What shows that rows are missing or damaged, and what is still intact."""
