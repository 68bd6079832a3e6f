"""Description of a problem: errors of the closed forms, equivalent power law, uncertainty."""
