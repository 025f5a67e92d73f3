"""The paper, reproduced item by item."""
