"""The wave equation at any order: its terms, its fields, its energy."""
