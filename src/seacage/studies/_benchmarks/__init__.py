"""The study of multifidelity methods on published benchmark functions, against peers."""
