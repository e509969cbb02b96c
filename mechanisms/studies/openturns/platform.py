import csv
import subprocess

import openturns as ot

ot.RandomGenerator.SetSeed(1)
plays = ["joints.leg%d.%s.clearance.radial_clearance" % (leg, joint) for leg in (1, 2, 3) for joint in "BC"]
inputs = ot.ComposedDistribution([ot.Normal(1e-4, 1e-5)] * len(plays))
inputs.setDescription(plays)


def errors(sample):
    design = ot.Sample(sample)
    design.setDescription(plays)
    design.exportToCSVFile("points.csv", ",")
    subprocess.run(["freeplay", "study", "run", "platform.yaml", "--out", "results", "--restart", "--quiet"], check=True)
    with open("results/study.csv") as file:
        return [[1e6 * float(row["dx"])] for row in csv.DictReader(file)]


count = 1024
design = ot.SobolIndicesExperiment(inputs, count).generate()
indices = ot.SaltelliSensitivityAlgorithm(design, errors(design), count)
print("first order", *indices.getFirstOrderIndices())
print("total", *indices.getTotalOrderIndices())

model = ot.PythonFunction(len(plays), 1, func_sample=errors)
model.setGradient(ot.CenteredFiniteDifferenceGradient([1e-7] * len(plays), model.getEvaluation()))
error = ot.CompositeRandomVector(model, ot.RandomVector(inputs))
form = ot.FORM(ot.AbdoRackwitz(), ot.ThresholdEvent(error, ot.Greater(), 280), inputs.getMean())
form.run()
print("beta", form.getResult().getHasoferReliabilityIndex())
print("probability", form.getResult().getEventProbability())
