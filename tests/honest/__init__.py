"""Three hundred drawn cases, each against the same solved four times finer on a longer record.

`python -m tests.honest` computes and compares, `tests/test_honest.py` does so for every tenth case.
"""
