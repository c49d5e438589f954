"""What a result looks like: findings and curves, text, documents, pictures, files."""
