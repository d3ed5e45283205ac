"""What goes over the doors: the bodies of calls and answers, and the samples in them."""
