#!/usr/bin/env python3
"""The provider of packaging/qgis with the real command, in QGIS or in a stub of it.

    qgis_provider.py FLAUNAY SOURCE [qgis]     qgis: in QGIS (Debian: python3-qgis and qgis-providers)

QGIS_PREFIX_PATH says where QGIS is, if not in /usr.
"""
import os
import sqlite3
import sys
import tempfile
import types
from pathlib import Path

FLAUNAY, SOURCE, IN_QGIS = sys.argv[1], Path(sys.argv[2]), "qgis" in sys.argv[3:]
DATA = SOURCE / "tests" / "data"
SAMPLES, CONTOURS = str(DATA / "garden-samples.fgb"), str(DATA / "garden-contours.shp")
sys.path.insert(0, str(SOURCE / "packaging" / "qgis"))
sys.dont_write_bytecode = True


class Feedback:
    """Of a run that nobody cancels."""

    def __init__(self):
        self.lines = []

    def isCanceled(self):
        return False

    def pushInfo(self, text):
        self.lines.append(text)

    pushCommandInfo = pushInfo


class Parameter:
    """Any parameter of an algorithm."""

    Any = Numeric = Double = None

    def __init__(self, name, *_, **options):
        self.name = name
        parent = options.get("parentLayerParameterName")
        assert parent in (None, "INPUT", "BREAKLINES"), parent


class AlgorithmStub:
    """Takes parameters as they are given. Only declared ones may be."""

    def __init__(self):
        self.declared = []

    def addParameter(self, parameter):
        self.declared.append(parameter.name)

    def parameterAsSource(self, parameters, name, context):
        return parameters.get(name)

    parameterAsOutputLayer = parameterAsDouble = parameterAsBoolean = parameterAsSource

    def parameterAsCompatibleSourceLayerPathAndLayerName(self, parameters, name, *_):
        return parameters[name].partition("|layername=")[::2]

    def parameterAsFields(self, parameters, name, context):
        given = parameters.get(name) or []
        return [given] if isinstance(given, str) else list(given)


def stub():
    """Makes a module qgis.core. Returns a call in the place of processing.run."""
    core = types.ModuleType("qgis.core")
    for kind in ("Boolean", "Extent", "FeatureSource", "Field", "Number", "RasterDestination", "VectorDestination"):
        setattr(core, "QgsProcessingParameter" + kind, Parameter)
    core.QgsProcessingAlgorithm = AlgorithmStub
    core.QgsProcessingException = type("QgsProcessingException", (Exception,), {})
    core.QgsProcessing = types.SimpleNamespace(TypeVectorPoint=0, TypeVectorLine=1, TypeVectorPolygon=2)
    core.QgsProcessingProvider = type(
        "QgsProcessingProvider", (), {"addAlgorithm": lambda self, one: algorithms.update({one.name(): one})}
    )
    registry = types.SimpleNamespace(addProvider=lambda provider: provider.loadAlgorithms())
    core.QgsApplication = types.SimpleNamespace(processingRegistry=lambda: registry)
    sys.modules.update({"qgis": types.ModuleType("qgis"), "qgis.core": core})
    algorithms = {}

    def run(name, parameters):
        algorithm = algorithms[name].createInstance()
        algorithm.initAlgorithm()
        assert parameters.keys() <= set(algorithm.declared), (parameters, algorithm.declared)
        return algorithm.processAlgorithm({"SPLIT": True, "RESOLUTION": 1, **parameters}, None, Feedback())

    return run


def real():
    """Starts QGIS without windows. Returns a call of processing.run."""
    os.environ.setdefault("QT_QPA_PLATFORM", "offscreen")
    from qgis.core import QgsApplication

    prefix = os.environ.get("QGIS_PREFIX_PATH", "/usr")
    QgsApplication.setPrefixPath(prefix, True)
    real.application = QgsApplication([], False)
    real.application.initQgis()
    sys.path.insert(0, prefix + "/share/qgis/python/plugins")
    import processing
    from processing.core.Processing import Processing

    Processing.initialize()
    return lambda name, parameters, **more: processing.run("flaunay:" + name, parameters, **more)


def rows_of(path, query):
    with sqlite3.connect(path) as database:
        return database.execute(query).fetchall()


def main(folder, run):
    points = {"INPUT": SAMPLES, "HEIGHT": "height"}
    fields = {"FIELDS": ["class", "intensity"]}
    lines = {"BREAKLINES": CONTOURS, "LINE_HEIGHT": "height"}
    made = run("delaunay", {**points, **fields, "OUTPUT": str(folder / "t.gpkg")})["OUTPUT"]
    ((count, low, high),) = rows_of(made, 'select count(*), min("class"), max(z) from triangles')
    assert count > 400 and low >= 2 and high > 1350, (count, low, high)
    # A layer of a file with a name.
    fields = {"FIELDS": ["surface", "intensity"]}
    cells = run("voronoi", {"INPUT": SAMPLES, **fields, "OUTPUT": str(folder / "v.gpkg")})["OUTPUT"]
    found = rows_of(cells, "select surface, intensity from cells")
    assert len(found) == 226 and {type(value) for row in found for value in row} == {str, int}, found[:3]
    made = run("tin", {**points, **lines, "OUTPUT": str(folder / "tin.gpkg")})["OUTPUT"]
    ((count, low),) = rows_of(made, "select count(*), min(z) from triangles")
    assert count > 1900 and low > 1350, (count, low)
    for more in ({}, lines, {**lines, "BOUNDARY": made + "|layername=triangles"}):
        dem = run("terrain", {**points, **more, "RESOLUTION": 2, "OUTPUT": str(folder / "dem.tif")})["OUTPUT"]
        assert Path(dem).read_bytes()[:2] == b"II"
    try:
        run("delaunay", {"INPUT": SAMPLES, "OUTPUT": str(folder / "no.obj/t.gpkg")})
    except Exception as error:
        assert "no.obj" in str(error), error
    else:
        raise AssertionError("a folder that does not exist was written to")
    if IN_QGIS:
        in_real_qgis(folder, run)
    os.environ["FLAUNAY_COMMAND"] = str(folder / "nothing")
    try:
        run("delaunay", {**points, "OUTPUT": str(folder / "t.gpkg")})
    except Exception as error:
        assert "nothing cannot be run: No such file" in str(error), error


def in_real_qgis(folder, run):
    """Layers in memory, with selected features alone; extents; what QGIS makes of files; runs that end early."""
    from qgis.core import QgsFeature, QgsGeometry, QgsPointXY, QgsProcessingException, QgsProcessingFeedback
    from qgis.core import QgsProcessingFeatureSourceDefinition, QgsProject, QgsRasterLayer, QgsVectorLayer

    layer = QgsVectorLayer("Point?crs=EPSG:32104&field=v:double", "points", "memory")
    for k in range(5):
        feature = QgsFeature(layer.fields())
        feature.setGeometry(QgsGeometry.fromPointXY(QgsPointXY(k * k, k)))
        feature["v"] = k
        layer.dataProvider().addFeature(feature)
    QgsProject.instance().addMapLayer(layer)
    layer.selectByIds([1, 2, 3])
    chosen = QgsProcessingFeatureSourceDefinition(layer.id(), True)
    output = str(folder / "memory.gpkg")
    run("delaunay", {"INPUT": chosen, "HEIGHT": "v", "OUTPUT": output})
    assert rows_of(output, "select z from triangles") == [(1.0,)]
    run("voronoi", {"INPUT": layer, "EXTENT": "-1,20,-1,5 [EPSG:32104]", "OUTPUT": output})
    assert rows_of(output, "select count(*), sum(area) from cells") == [(5, 126.0)]
    found = QgsVectorLayer(output, "cells", "ogr")
    assert found.isValid() and found.crs().authid() == "EPSG:32104" and found.featureCount() == 5
    dem = QgsRasterLayer(str(folder / "dem.tif"), "dem")
    assert dem.isValid() and dem.crs().authid() == "EPSG:32104"
    stopped = QgsProcessingFeedback()
    stopped.cancel()
    layer.removeSelection()
    for source, feedback, part in ((layer, stopped, "Cancelled"), (chosen, None, "no feature with a geometry")):
        try:
            run("delaunay", {"INPUT": source, "OUTPUT": str(folder / "no.gpkg")}, feedback=feedback)
        except QgsProcessingException as error:
            assert part in str(error), error
        else:
            raise AssertionError(part)
    assert not list(folder.glob("no.gpkg*"))


if __name__ == "__main__":
    call = real() if IN_QGIS else stub()
    os.environ["FLAUNAY_COMMAND"] = FLAUNAY
    import flaunay

    plugin = flaunay.classFactory(None)
    plugin.initProcessing()
    with tempfile.TemporaryDirectory() as name:
        main(Path(name), call)
    sys.stdout.flush()
    os._exit(0)  # QGIS has no orderly end in every version
