"""The study of multifidelity methods on published benchmark functions, against peers."""

from seacage.studies._benchmarks._study import BenchmarkStudy, benchmark_study

__all__ = ["BenchmarkStudy", "benchmark_study"]
