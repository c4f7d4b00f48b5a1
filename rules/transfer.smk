STUDY_RESULTS["transfer"] = ["data/results/transfer/observations.csv"]
