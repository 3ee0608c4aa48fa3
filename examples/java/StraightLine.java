// A planner of its own, in Java: the straight line from start to goal, if the scene server finds it free. It does what
// lcmtypes/README.md says under "One request, step by step".
import java.util.*;
import java.util.concurrent.*;
import lcm.lcm.*;
import planbench.*;

public class StraightLine implements LCMSubscriber {
  final String name, channel;
  final LCM lcm = new LCM(System.getenv("LCM_DEFAULT_URL"));
  final long start = utime();
  final String instance = UUID.randomUUID().toString().replace("-", "").substring(0, 16);
  final Map<String, lcmt_plan_result> results = new LinkedHashMap<>() {
    protected boolean removeEldestEntry(Map.Entry<String, lcmt_plan_result> eldest) { return size() > 64; }
  };
  final BlockingQueue<lcmt_plan_request> work = new LinkedBlockingQueue<>();
  final BlockingQueue<lcmt_collision_reply> replies = new LinkedBlockingQueue<>();
  volatile String cancelled = "";  // request_id
  lcmt_plan_request current;  // null: idle
  lcmt_problem_sets sets;     // of the scene server; null: not heard yet

  StraightLine(String name) throws Exception {
    this.name = name;
    channel = name.toUpperCase(Locale.ROOT).replace('-', '_');
    lcm.subscribe("NODE_STATUS|PROBLEM_SETS|DISCOVER|COLLISION_REPLY|PLAN_(REQUEST|CANCEL)_" + channel, this);
  }

  static long utime() { return System.currentTimeMillis() * 1000; }
  public synchronized void messageReceived(LCM lcm, String from, LCMDataInputStream in) {
    try {
      if (from.equals("PROBLEM_SETS")) sets = new lcmt_problem_sets(in);
      else if (from.equals("DISCOVER")) announce();
      else if (from.equals("COLLISION_REPLY")) replies.add(new lcmt_collision_reply(in));
      else if (from.startsWith("PLAN_REQUEST_")) answer(new lcmt_plan_request(in));
      else if (from.equals("NODE_STATUS")) leaveToAnOlder(new lcmt_node_status(in));
      else send(results.get(cancelled = new lcmt_plan_cancel(in).request_id));
    } catch (Exception | OutOfMemoryError error) {  // of a damaged message, or it would end LCM's thread, which hears all
      System.err.println(from + ": " + error);
    }
  }

  // A newcomer leaves to an older process of its name; what is 10 s old is a recording that is played.
  void leaveToAnOlder(lcmt_node_status other) {
    if (!other.name.equals(name) || utime() - start > 3000000 || utime() - other.utime > 10000000) return;
    boolean older = other.start_utime < start || other.start_utime == start && other.instance.compareTo(instance) < 0;
    if (!older) return;
    System.err.printf("'%s' is live already (host %s, pid %d): choose another%n", name, other.host, other.pid);
    Runtime.getRuntime().halt(2);
  }

  void send(lcmt_plan_result result) { if (result != null) lcm.publish("PLAN_RESULT_" + channel, result); }

  // Every copy of a request is answered at once: with its result, or with what becomes of it.
  void answer(lcmt_plan_request request) {
    if (results.containsKey(request.request_id)) { send(results.get(request.request_id)); return; }
    lcmt_plan_ack ack = new lcmt_plan_ack();
    ack.utime = utime(); ack.planner = name; ack.request_id = request.request_id; ack.message = refusal(request);
    if (ack.message.isEmpty() && current == null) work.add(current = request);
    ack.verdict = !ack.message.isEmpty() ? lcmt_plan_ack.REFUSED
        : current.request_id.equals(request.request_id) ? lcmt_plan_ack.WORKING : lcmt_plan_ack.BUSY;
    lcm.publish("PLAN_ACK_" + channel, ack);
  }

  // Why a request cannot be worked on, "" if it can.
  String refusal(lcmt_plan_request request) {
    boolean mine = sets == null || request.robot_id.isEmpty() || request.robot_id.equals(sets.robot_id);
    if (!mine) return "it is for another robot";
    if (!request.collision_model.equals("spheres")) return "the collision model is not spheres";
    boolean special = request.anytime || request.direction == lcmt_plan_request.BACKWARD ||
        request.initial_path.num_waypoints > 0;
    return special ? "anytime, backward and initial_path are not supported" : "";
  }

  synchronized void announce() throws java.io.IOException {
    if (sets == null) return;  // the robot's id is the scene server's
    lcmt_node_status s = new lcmt_node_status();
    s.utime = utime(); s.start_utime = start; s.kind = lcmt_node_status.KIND_PLANNER;
    s.state = current == null ? lcmt_node_status.STATE_IDLE : lcmt_node_status.STATE_BUSY;
    s.request_id = current == null ? "" : current.request_id;
    s.name = name; s.instance = instance; s.trouble = ""; s.host = java.net.InetAddress.getLocalHost().getHostName(); s.version = s.commit = "example"; s.pid = (int) ProcessHandle.current().pid();
    s.robot_name = sets.robot_name; s.robot_id = sets.robot_id;
    s.algorithm = "Straight line (Java)"; s.planner_class = "search-and-sample"; s.deterministic = true;
    s.num_collision_models = 1; s.collision_model = new String[] {"spheres"}; s.setting = s.unusable_model = new lcmt_key_value[0];
    lcm.publish("NODE_STATUS", s);
  }

  lcmt_plan_result plan(lcmt_plan_request request) throws InterruptedException {
    long begin = System.nanoTime();
    // A goal for each joint of the group, in its order; of alternatives, which follow one another, the first is taken.
    int n = (int) Arrays.stream(request.goal).map(goal -> goal.joint_name).distinct().count();
    String[] joints = new String[n];
    double[][] line = new double[2][n];
    for (int i = 0; i < n; ++i) {
      joints[i] = request.goal[i].joint_name;
      line[0][i] = request.start.position[Arrays.asList(request.start.joint_name).indexOf(joints[i])];
      line[1][i] = request.goal[i].position;
    }
    lcmt_collision_request q = new lcmt_collision_request();
    q.utime = utime(); q.request_id = name + "-" + UUID.randomUUID();
    q.scene_id = request.scene_id; q.group = request.group; q.state = request.start;
    q.collision_model = request.collision_model; q.edge_check = request.edge_check;
    q.edge_resolution_m = request.edge_resolution_m; q.num_joints = n; q.num_edges = 1;
    q.position = new double[0][]; q.edge_from = new double[][] {line[0]}; q.edge_to = new double[][] {line[1]};
    lcmt_collision_reply reply = null;
    boolean cancel = false;
    while (reply == null && !cancel && System.nanoTime() - begin < request.time_limit_s * 1e9) {
      lcm.publish("COLLISION_REQUEST", q);  // again until it is answered
      reply = replies.poll(250, TimeUnit.MILLISECONDS);
      while (reply != null && !reply.request_id.equals(q.request_id)) reply = replies.poll();
      cancel = cancelled.equals(request.request_id);
    }
    boolean free = reply != null && reply.ok && reply.edge[0].free && reply.edge[0].within_limits;
    lcmt_plan_result r = new lcmt_plan_result();
    r.planner = name; r.run_id = request.run_id; r.request_id = request.request_id;
    r.status = free ? r.SOLVED : reply == null ? (cancel ? r.CANCELLED : r.TIMED_OUT) : reply.ok ? r.EXHAUSTED : r.INVALID_REQUEST;
    r.message = free ? "" : reply == null ? (cancel ? "cancelled" : "no answer") : reply.ok ? "the straight line is not free" : reply.message;
    r.path = free ? pathOf(joints, line) : pathOf(new String[0], new double[0][]);
    r.simplified_path = request.simplify ? r.path : pathOf(new String[0], new double[0][]);
    r.progress = new lcmt_plan_progress[0]; r.counter = new lcmt_named_value[0];
    r.planning_time_s = r.total_time_s = (System.nanoTime() - begin) / 1e9; r.utime = utime();
    return r;
  }

  static lcmt_path pathOf(String[] joints, double[][] waypoints) {
    lcmt_path path = new lcmt_path();
    path.joint_name = joints; path.position = waypoints;
    path.num_joints = joints.length; path.num_waypoints = waypoints.length;
    return path;
  }

  public static void main(String[] args) throws Exception {
    StraightLine planner = new StraightLine(args.length > 0 ? args[0] : "straight");
    while (true) {
      planner.announce();
      lcmt_plan_request request = planner.work.poll(500, TimeUnit.MILLISECONDS);
      lcmt_plan_result result = request == null ? null : planner.plan(request);
      if (result != null) synchronized (planner) {
        planner.results.put(request.request_id, result);
        planner.current = null;
        planner.send(result);
      }
    }
  }
}
