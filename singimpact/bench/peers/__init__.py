"""What a user would pick instead: each as its own documentation shows it. They are imported when they are timed."""
