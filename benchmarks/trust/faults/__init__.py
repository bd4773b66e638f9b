"""What users meet, each as a `Fault`: of sensors, joints, plates, and written rows."""
