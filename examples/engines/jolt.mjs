// Jolt (MIT licence, npm jolt-physics): a soft body of the edges of a body exported with --to jolt.
import init from 'jolt-physics';
import {frame, gravity, settle, text} from './settle.mjs';

const body = JSON.parse(text), pinned = new Set(Object.values(body.pins).flat());
const Jolt = await init();

// One layer, in which nothing collides.
const settings = new Jolt.JoltSettings(), layers = new Jolt.ObjectLayerPairFilterTable(1);
const broad = new Jolt.BroadPhaseLayerInterfaceTable(1, 1);
broad.MapObjectToBroadPhaseLayer(0, new Jolt.BroadPhaseLayer(0));
settings.mObjectLayerPairFilter = layers;
settings.mBroadPhaseLayerInterface = broad;
settings.mObjectVsBroadPhaseLayerFilter = new Jolt.ObjectVsBroadPhaseLayerFilterTable(broad, 1, layers, 1);
const jolt = new Jolt.JoltInterface(settings), system = jolt.GetPhysicsSystem();
system.SetGravity(new Jolt.Vec3(0, 0, -gravity));

const shared = new Jolt.SoftBodySharedSettings();
body.nodes.position_m.forEach((at, i) => {
  const vertex = new Jolt.SoftBodySharedSettingsVertex();
  vertex.mPosition = new Jolt.Float3(...at);
  vertex.mInvMass = pinned.has(i) ? 0 : 1 / body.nodes.mass_kg[i];
  shared.mVertices.push_back(vertex);
});
body.edges.nodes.forEach(([i, j], s) =>
  shared.mEdgeConstraints.push_back(new Jolt.SoftBodySharedSettingsEdge(i, j, body.edges.compliance_m_N[s])));
shared.CalculateEdgeLengths();
shared.Optimize();

const creation = new Jolt.SoftBodyCreationSettings(shared, new Jolt.RVec3(0, 0, 0), new Jolt.Quat(0, 0, 0, 1), 0);
creation.mNumIterations = Math.ceil(frame / body.substeps.most_s);  // substeps: longer ones make the body softer
creation.mLinearDamping = 0;
creation.mUpdatePosition = false;
creation.mAllowSleeping = false;
const soft = system.GetBodyInterface().CreateSoftBody(creation);
system.GetBodyInterface().AddBody(soft.GetID(), Jolt.EActivation_Activate);
const motion = Jolt.castObject(soft.GetMotionProperties(), Jolt.SoftBodyMotionProperties);
const vertices = body.nodes.position_m.map((_, i) => motion.GetVertex(i));

settle({
  positions: () => vertices.flatMap(({mPosition: p}) => [p.GetX(), p.GetY(), p.GetZ()]),
  step: () => jolt.Step(frame, 1),
  slow: share => vertices.forEach(vertex => { vertex.mVelocity = vertex.mVelocity.Mul(share); }),
});
