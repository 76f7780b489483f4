"""flaunay in QGIS: a provider of Processing whose algorithms call the command `flaunay`."""

import os
import shutil
import subprocess
import tempfile

from qgis.core import (
    QgsApplication,
    QgsProcessing,
    QgsProcessingAlgorithm,
    QgsProcessingException,
    QgsProcessingParameterBoolean,
    QgsProcessingParameterExtent,
    QgsProcessingParameterFeatureSource,
    QgsProcessingParameterField,
    QgsProcessingParameterNumber,
    QgsProcessingParameterRasterDestination,
    QgsProcessingParameterVectorDestination,
    QgsProcessingProvider,
)

LAYERS = ["gpkg", "shp", "fgb", "geojson"]


def find_command():
    command = os.environ.get("FLAUNAY_COMMAND") or shutil.which("flaunay")
    if not command:
        raise QgsProcessingException(
            "The command flaunay is not on the PATH: install it, built with -DFLAUNAY_GDAL=ON, or say by the "
            "environment variable FLAUNAY_COMMAND where it is"
        )
    return command


def run(arguments, feedback):
    """Runs the command until it ends or the user cancels it."""
    arguments = [find_command(), *map(str, arguments)]
    feedback.pushCommandInfo(subprocess.list2cmdline(arguments))
    with tempfile.TemporaryFile("w+", encoding="utf-8", errors="replace") as output:
        try:
            process = subprocess.Popen(arguments, stdin=subprocess.DEVNULL, stdout=output, stderr=output)
        except OSError as error:
            raise QgsProcessingException(f"{arguments[0]} cannot be run: {error.strerror}") from error
        while process.poll() is None:
            if feedback.isCanceled():
                process.terminate()
            try:
                process.wait(0.1)
            except subprocess.TimeoutExpired:
                continue
        output.seek(0)
        said = output.read().strip()
    if feedback.isCanceled():
        raise QgsProcessingException("Cancelled")
    if process.returncode != 0:
        raise QgsProcessingException(said or f"flaunay ended with {process.returncode}")
    feedback.pushInfo(said)


class Algorithm(QgsProcessingAlgorithm):
    """What all algorithms share. Those below say which subcommand they call, and with what."""

    INPUT, OUTPUT = "INPUT", "OUTPUT"

    def createInstance(self):
        return type(self)()

    def name(self):
        return self.NAME

    def displayName(self):
        return self.TITLE

    def shortHelpString(self):
        return self.HELP

    def add_points(self):
        self.addParameter(
            QgsProcessingParameterFeatureSource(self.INPUT, "Points", [QgsProcessing.TypeVectorPoint])
        )
        self.add_field("HEIGHT", "Field with the height (by default, that of the points)")

    def add_breaklines(self, optional):
        kinds = [QgsProcessing.TypeVectorLine, QgsProcessing.TypeVectorPolygon]
        self.add_layer("BREAKLINES", "Breaklines", kinds, optional)
        self.add_field("LINE_HEIGHT", "Field with the height of breaklines", layer="BREAKLINES")

    def add_field(self, name, title, several=False, layer=INPUT, kind=QgsProcessingParameterField.Numeric):
        self.addParameter(
            QgsProcessingParameterField(
                name,
                title,
                parentLayerParameterName=layer,
                type=kind,
                allowMultiple=several,
                optional=True,
            )
        )

    def add_layer(self, name, title, kinds, optional=True):
        self.addParameter(QgsProcessingParameterFeatureSource(name, title, kinds, optional=optional))

    def add_output(self, title, kind=QgsProcessing.TypeVectorPolygon):
        self.addParameter(QgsProcessingParameterVectorDestination(self.OUTPUT, title, kind))

    def source(self, name, parameters, context, feedback):
        """The path of a layer for the command; None if there is none. QGIS writes one that has no file."""
        if self.parameterAsSource(parameters, name, context) is None:
            return None
        path, layer = self.parameterAsCompatibleSourceLayerPathAndLayerName(
            parameters, name, context, LAYERS[:3], "gpkg", feedback
        )
        return f"{path}:{layer}" if layer and path.lower().endswith(".gpkg") else path

    def options(self, parameters, context, feedback, **maps):
        """The points, options that all algorithms have, and those of maps by their parameters."""
        found = [self.source(self.INPUT, parameters, context, feedback)]
        for option, name in (("height", "HEIGHT"), ("line-height", "LINE_HEIGHT"), ("fields", "FIELDS")):
            fields = self.parameterAsFields(parameters, name, context)
            if fields:
                found += [f"--{option}", ",".join(fields)]
        for option, name in maps.items():
            path = self.source(name, parameters, context, feedback)
            if path:
                found += [f"--{option}", path]
        return found

    def processAlgorithm(self, parameters, context, feedback):
        output = self.parameterAsOutputLayer(parameters, self.OUTPUT, context)
        run([*self.arguments(parameters, context, feedback), "-o", output], feedback)
        return {self.OUTPUT: output}


class Delaunay(Algorithm):
    NAME, TITLE = "delaunay", "Delaunay triangulation"
    HELP = (
        "Triangles of points, with the numbers of their points from 0 on, and the means of their heights and of "
        "the chosen fields."
    )

    def initAlgorithm(self, configuration=None):
        self.add_points()
        self.add_field("FIELDS", "Fields whose means triangles have", several=True)
        self.add_output("Triangles")

    def arguments(self, *given):
        return ["triangulate", *self.options(*given)]


class ConstrainedTin(Algorithm):
    NAME, TITLE = "tin", "Constrained TIN from breaklines"
    HELP = (
        "Triangles of points of which breaklines are edges. Lines without heights have those of the points around "
        "them. Lines that cross are cut there."
    )

    def initAlgorithm(self, configuration=None):
        self.add_points()
        self.add_breaklines(optional=False)
        self.add_field("FIELDS", "Fields whose means triangles have", several=True)
        self.add_output("Triangles")

    def arguments(self, *given):
        return ["triangulate", *self.options(*given, constraints="BREAKLINES"), "--crossings", "split"]


class Voronoi(Algorithm):
    NAME, TITLE = "voronoi", "Voronoi polygons"
    HELP = (
        "Of each point the places that are nearest to it, within an extent; by default a tenth beyond the points. "
        "They have the number of the point, and the chosen fields."
    )

    def initAlgorithm(self, configuration=None):
        self.add_points()
        any_kind = QgsProcessingParameterField.Any
        self.add_field("FIELDS", "Fields that polygons have", several=True, kind=any_kind)
        self.addParameter(QgsProcessingParameterExtent("EXTENT", "Extent", optional=True))
        self.add_output("Polygons")

    def arguments(self, parameters, context, feedback):
        found = ["voronoi", *self.options(parameters, context, feedback)]
        if parameters.get("EXTENT"):
            source = self.parameterAsSource(parameters, self.INPUT, context)
            box = self.parameterAsExtent(parameters, "EXTENT", context, source.sourceCrs())
            corners = (box.xMinimum(), box.yMinimum(), box.xMaximum(), box.yMaximum())
            found.append("--bounds=" + ",".join(map(repr, corners)))
        return found


class Terrain(Algorithm):
    NAME, TITLE = "terrain", "Terrain raster"
    HELP = (
        "Heights that are linear in the triangles of points, of which breaklines are edges. Outside of a boundary "
        "there are none; lakes are flat."
    )

    def initAlgorithm(self, configuration=None):
        self.add_points()
        self.addParameter(
            QgsProcessingParameterNumber(
                "RESOLUTION",
                "Size of a pixel",
                QgsProcessingParameterNumber.Double,
                defaultValue=1,
                minValue=1e-9,
            )
        )
        self.add_breaklines(optional=True)
        self.add_layer("BOUNDARY", "Boundary", [QgsProcessing.TypeVectorPolygon])
        self.add_layer("FLAT", "Lakes", [QgsProcessing.TypeVectorPolygon])
        self.addParameter(
            QgsProcessingParameterBoolean("SPLIT", "Cut breaklines where they cross", defaultValue=True)
        )
        self.addParameter(QgsProcessingParameterRasterDestination(self.OUTPUT, "Heights"))

    def arguments(self, parameters, context, feedback):
        maps = {"breaklines": "BREAKLINES", "boundary": "BOUNDARY", "flat": "FLAT"}
        size = self.parameterAsDouble(parameters, "RESOLUTION", context)
        found = ["terrain", *self.options(parameters, context, feedback, **maps), "--resolution", repr(size)]
        split = self.parameterAsBoolean(parameters, "SPLIT", context)
        return [*found, "--crossings", "split" if split else "error"]


class Provider(QgsProcessingProvider):
    def id(self):
        return "flaunay"

    def name(self):
        return "flaunay"

    def loadAlgorithms(self):
        for algorithm in (Delaunay, ConstrainedTin, Voronoi, Terrain):
            self.addAlgorithm(algorithm())

    def supportedOutputVectorLayerExtensions(self):
        return LAYERS

    def supportedOutputRasterLayerExtensions(self):
        return ["tif"]


class Plugin:
    def __init__(self):
        self.provider = None

    def initProcessing(self):
        self.provider = Provider()
        QgsApplication.processingRegistry().addProvider(self.provider)

    def initGui(self):
        self.initProcessing()

    def unload(self):
        QgsApplication.processingRegistry().removeProvider(self.provider)


def classFactory(iface):
    return Plugin()
