"""One self-contained HTML page from the folder of a run: reads what is stored, computes and judges nothing."""
